#!/usr/bin/python3
"""Services of the map: queries tell what is published, edits change it, files hold it."""
import math
import tempfile

import rosbag
import rospy
import rostest
from std_msgs.msg import Header
from std_srvs.srv import Trigger

import make_bag_variants
from geometry_msgs.msg import Point
from fiimap.msg import MapInfo, OtherVehicle, OtherVehicles
from fiimap.srv import (
    CastRays, CastRaysRequest, ClearBox, ClearBoxRequest, GetBox, GetBoxResponse, LoadMap, QueryPoints,
    SaveMap)
from process import PATIENCE
from rostest_support import FLIGHT_BAG, PATIENT_QUEUES, MapTest, cut, program, wait_for
from voxels import voxels_at, voxels_of_cloud, voxels_of_pcd

FORM = ('points', 'odometry')
RESOLUTION = 0.1
PARAMETERS = {**PATIENT_QUEUES, 'sensor': FORM[0], 'resolution': RESOLUTION}
SCANS = 20
BOX_REACH = 20  # voxels


def center(voxel):
    return Point(*(RESOLUTION * (c + 0.5) for c in voxel))


class ServicesTest(MapTest):
    @classmethod
    def setUpClass(cls):
        cls.bag_folder = tempfile.TemporaryDirectory()
        cls.whole_bag = make_bag_variants.write_variants(
            FLIGHT_BAG, cls.bag_folder.name, 2 * SCANS, [FORM])[FORM]

    @classmethod
    def tearDownClass(cls):
        cls.bag_folder.cleanup()

    def setUp(self):
        self.bag = cut(self.whole_bag, self.directory / 'flight.bag', '/points', SCANS)
        self.target = self.directory / 'maps'
        self.target.mkdir()

    def call(self, service, kind, *arguments):
        name = f'/map/{service}'
        rospy.wait_for_service(name)
        return rospy.ServiceProxy(name, kind)(*arguments)

    def save(self, name):
        return self.call('save_map', SaveMap, name)

    def assert_refused(self, response, *words):
        self.assertFalse(response.success, response)
        for word in words:
            self.assertIn(word, response.message)
        self.assertEqual(list(self.target.iterdir()), [])

    def start_and_play(self, **parameters):
        _, listener = self.start_map({**PARAMETERS, **parameters})
        self.play(self.bag, '--rate=2')
        listener.wait_for_integrated(SCANS)
        return listener

    def octomap(self, file):
        """Occupied voxels and the number of free ones as the OctoMap library reads them."""
        listing = self.start(program('fiimap', 'list_octomap'), file)
        self.assertEqual(listing.wait(), 0, listing.output())
        lines = [line.split() for line in listing.output().splitlines()]
        numbers = {words[0]: float(words[1]) for words in lines if len(words) == 2}
        self.assertEqual(numbers['resolution'], RESOLUTION)
        centres = [[float(word) for word in words[1:]] for words in lines if len(words) == 4]
        return voxels_at(centres, RESOLUTION), int(numbers['free'])

    def test_save_map_writes_what_is_published(self):
        listener = self.start_and_play(save_directory=str(self.target))
        response = self.save('flight-1.a_b')
        self.assertTrue(response.success, response.message)
        files = {f'flight-1.a_b{end}' for end in ('_occupied.pcd', '_inflated.pcd', '.bt')}
        self.assertEqual({file.name for file in self.target.iterdir()}, files)

        occupied, inflated = (voxels_of_cloud(cloud, RESOLUTION)
                              for cloud in listener.wait_for_clouds())
        self.assertEqual(len(occupied), listener.newest().occupied)
        self.assertEqual(len(inflated), listener.newest().inflated)
        base = self.target / 'flight-1.a_b'
        self.assertEqual(voxels_of_pcd(f'{base}_occupied.pcd', RESOLUTION), occupied)
        self.assertEqual(voxels_of_pcd(f'{base}_inflated.pcd', RESOLUTION), inflated)
        in_octomap, free = self.octomap(f'{base}.bt')
        self.assertEqual(in_octomap, occupied)
        self.assertGreater(free, len(occupied))

        self.evaluate(self.bag, PARAMETERS)
        self.assertEqual((self.directory / 'offline.bt').read_bytes(),
                         (self.target / 'flight-1.a_b.bt').read_bytes())

    def test_save_map_replaces_files(self):
        self.start_and_play(save_directory=str(self.target))
        old = self.target / 'again_occupied.pcd'
        old.write_text('old')
        self.assertTrue(self.save('again').success)
        self.assertGreater(len(voxels_of_pcd(old, RESOLUTION)), 0)

    def test_save_map_refuses_bad_names(self):
        self.start_and_play(save_directory=str(self.target))
        for name in ('', 'a/b', '../up', '/tmp/absolute', '.hidden', 'a b', 'a\n'):
            self.assert_refused(self.save(name), 'name', name.strip())

    def test_save_map_refuses_without_directory(self):
        self.start_and_play()
        self.assert_refused(self.save('room'), 'save_directory')

    def test_save_map_reports_a_directory_that_is_not_there(self):
        missing = self.directory / 'missing'
        self.start_and_play(save_directory=str(missing))
        self.assert_refused(self.save('room'), str(missing))

    def test_save_map_refuses_before_the_first_scan(self):
        self.start_map({**PARAMETERS, 'save_directory': str(self.target)})
        self.assert_refused(self.save('room'), 'no map yet')

    def test_get_box_tells_what_is_published(self):
        listener = self.start_and_play()
        occupied, inflated = (voxels_of_cloud(cloud, RESOLUTION)
                              for cloud in listener.wait_for_clouds())
        # Around an occupied voxel in the middle of the others.
        middle = sorted(map(tuple, occupied))[len(occupied) // 2]
        low, high = (Point(*(RESOLUTION * (c + 0.5 + side * BOX_REACH) for c in middle))
                     for side in (-1, 1))
        box = self.call('get_box', GetBox, low, high)
        self.assertTrue(box.success, box.message)
        first = [round(c / RESOLUTION) for c in (box.origin.x, box.origin.y, box.origin.z)]
        sizes = (box.size_x, box.size_y, box.size_z)
        self.assertEqual(sizes, 3 * (2 * BOX_REACH + 1,))
        self.assertEqual(len(box.voxels), sizes[0] * sizes[1] * sizes[2])
        found = (set(), set())
        for i, state in enumerate(box.voxels):
            steps = (i // (sizes[1] * sizes[2]), i // sizes[2] % sizes[1], i % sizes[2])
            voxel = tuple(f + s for f, s in zip(first, steps))
            for layer, value in zip(found, (state % 4, state // 4)):
                if value == GetBoxResponse.OCCUPIED:
                    layer.add(voxel)
        inside = [{v for v in map(tuple, voxels)
                   if all(f <= c < f + s for c, f, s in zip(v, first, sizes))}
                  for voxels in (occupied, inflated)]
        self.assertGreater(len(inside[0]), 0)
        self.assertEqual(found[0], inside[0])
        self.assertEqual(found[1], inside[1])

    def test_query_points_tells_what_is_published(self):
        listener = self.start_and_play()
        occupied, inflated = (voxels_of_cloud(cloud, RESOLUTION)
                              for cloud in listener.wait_for_clouds())
        voxels = sorted(inflated)
        away = Point(1e6, 0, 0)
        response = self.call('query_points', QueryPoints, [center(v) for v in voxels] + [away])
        self.assertTrue(response.success, response.message)
        self.assertEqual(response.header.stamp, listener.newest().header.stamp)
        *states, outside = response.states
        self.assertEqual({v for v, state in zip(voxels, states)
                          if state % 4 == GetBoxResponse.OCCUPIED}, occupied)
        self.assertEqual({state // 4 for state in states}, {GetBoxResponse.OCCUPIED})
        self.assertEqual(outside, 5 * GetBoxResponse.OUTSIDE)

    def test_cast_rays_stop_at_what_is_published(self):
        listener = self.start_and_play()
        occupied, _ = (voxels_of_cloud(cloud, RESOLUTION) for cloud in listener.wait_for_clouds())
        # Down on voxels that have nothing above them: only they can stop the ray.
        tops = {}
        for x, y, z in occupied:
            tops[x, y] = max(z, tops.get((x, y), z))
        voxels = [(x, y, z) for (x, y), z in sorted(tops.items())]
        request = CastRaysRequest(layer=CastRaysRequest.RAW, unknown=CastRaysRequest.FREE,
                                  outside=CastRaysRequest.FREE)
        height = 1.0
        for voxel in voxels:
            for target in (0.0, 1.0):  # to the voxel's centre; and so far above that it is not met
                point = center(voxel)
                request.starts.append(Point(point.x, point.y, point.z + target + height))
                request.ends.append(Point(point.x, point.y, point.z + target))
        response = self.call('cast_rays', CastRays, request)
        self.assertTrue(response.success, response.message)
        self.assertEqual(list(response.hit), [True, False] * len(voxels))
        for i, voxel in enumerate(voxels):
            self.assertAlmostEqual(response.distances[2 * i], height - RESOLUTION / 2)
            self.assertAlmostEqual(response.points[2 * i].z, (voxel[2] + 1) * RESOLUTION)
            self.assertAlmostEqual(response.distances[2 * i + 1], height)

    def test_clear_box_takes_obstacles_and_their_inflation_away(self):
        listener = self.start_and_play()
        occupied, inflated = (voxels_of_cloud(cloud, RESOLUTION)
                              for cloud in listener.wait_for_clouds())
        low, high = ([f(v[axis] for v in occupied) for axis in range(3)] for f in (min, max))
        middle = (low[0] + high[0]) // 2
        cleared = self.call('clear_box', ClearBox, center(low), center([middle, *high[1:]]),
                            ClearBoxRequest.UNKNOWN)
        self.assertTrue(cleared.success, cleared.message)
        sizes = [middle - low[0] + 1] + [high[axis] - low[axis] + 1 for axis in (1, 2)]
        self.assertEqual(cleared.voxels, math.prod(sizes))
        left = {v for v in occupied if v[0] > middle}
        self.assertTrue(0 < len(left) < len(occupied))
        wait_for(lambda: listener.clouds['occupied'].width == len(left), 'the cleared cloud')
        now = voxels_of_cloud(listener.clouds['occupied'], RESOLUTION)
        self.assertEqual(now, left)
        wait_for(lambda: listener.clouds['inflated'].width < len(inflated), 'its inflation')
        reach = 2  # voxels of the default radius
        steps = range(-reach, reach + 1)
        ball = [(dx, dy, dz) for dx in steps for dy in steps for dz in steps
                if dx * dx + dy * dy + dz * dz <= reach * reach]
        near = {(x + dx, y + dy, z + dz) for x, y, z in left for dx, dy, dz in ball}
        # The cloud before holds no voxel outside of the window.
        self.assertEqual(voxels_of_cloud(listener.clouds['inflated'], RESOLUTION), near & inflated)

        freed = self.call('clear_box', ClearBox, center(low), center(high), ClearBoxRequest.FREE)
        self.assertTrue(freed.success, freed.message)
        wait_for(lambda: {cloud.width for cloud in listener.clouds.values()} == {0}, 'empty clouds')
        response = self.call('query_points', QueryPoints, [center(v) for v in sorted(occupied)])
        self.assertEqual(set(response.states), {5 * GetBoxResponse.FREE})

    def test_load_map_gives_another_node_the_map_before_its_first_scan(self):
        listener = self.start_and_play(save_directory=str(self.target))
        clouds = [voxels_of_cloud(cloud, RESOLUTION) for cloud in listener.wait_for_clouds()]
        self.assertTrue(self.save('flight').success)
        info = rospy.wait_for_message('/map/map_handle', MapInfo, timeout=PATIENCE)
        middle = center([(low + high) // 2 for low, high in zip(info.window_min, info.window_max)])
        _, other = self.start_map({**PARAMETERS, 'save_directory': str(self.target)}, name='other')

        def load(name):
            rospy.wait_for_service('/other/load_map')
            return rospy.ServiceProxy('/other/load_map', LoadMap)(name, middle)
        missing = load('missing')
        self.assertFalse(missing.success)
        self.assertIn(f'{self.target}/missing.bt: cannot be read', missing.message)

        loaded = load('flight')
        self.assertTrue(loaded.success, loaded.message)
        self.assertEqual(loaded.occupied, len(clouds[0]))
        self.assertGreater(loaded.free, loaded.occupied)
        self.assertEqual(loaded.outside, 0, 'the window is the same')
        wait_for(lambda: len(other.clouds) == 2 and other.clouds['inflated'].width,
                 'clouds of the loaded map')
        self.assertEqual([voxels_of_cloud(other.clouds[layer], RESOLUTION)
                          for layer in ('occupied', 'inflated')], clouds)

        # Only the obstacles, over what is there.
        (self.target / 'flight.bt').unlink()
        loaded = load('flight')
        self.assertTrue(loaded.success, loaded.message)
        self.assertEqual((loaded.occupied, loaded.free), (len(clouds[0]), 0))

        self.play(self.bag, '--rate=2')
        self.assertEqual(other.wait_for_integrated(SCANS).dropped, 0)

    def test_get_box_refuses_before_the_first_scan_and_what_is_no_box(self):
        self.start_map(PARAMETERS)
        self.assertIn('no map yet', self.call('get_box', GetBox, Point(), Point()).message)

    def play_to(self, name, parameters, prepare=lambda: None):
        """The newest statistics of a map that is alone, so that it hears the whole recording."""
        process, listener = self.start_map({**PARAMETERS, **parameters}, name=name)
        prepare()
        self.play(self.bag, '--rate=2')
        newest = listener.wait_for_integrated(SCANS)
        self.assertEqual(process.interrupt(), 0, process.output())
        return newest

    def ignore_everything(self):
        with rosbag.Bag(str(self.bag)) as bag:
            start = rospy.Time(bag.get_start_time())
        publisher = rospy.Publisher('/blind/other_vehicles', OtherVehicles, queue_size=1)
        wait_for(publisher.get_num_connections, 'the subscriber of other vehicles')
        everywhere = OtherVehicle(radius=100.0, lifetime=rospy.Duration(60.0))
        publisher.publish(OtherVehicles(header=Header(stamp=start, frame_id='world'),
                                        vehicles=[everywhere]))

    def test_returns_on_other_vehicles_and_on_the_body_are_ignored(self):
        seeing = self.play_to('seeing', {})
        self.assertEqual(seeing.ignored, 0)
        blind = self.play_to('blind', {}, self.ignore_everything)
        self.assertEqual((blind.ignored, blind.returns, blind.occupied), (seeing.returns, 0, 0))
        large = self.play_to('large', {'body_size_x': 10.0, 'body_size_y': 10.0,
                                       'body_size_z': 10.0, 'clear_body': True})
        self.assertEqual(large.ignored + large.returns, seeing.returns)
        self.assertGreater(large.ignored, 0)

    def test_reset_forgets_and_mapping_goes_on(self):
        listener = self.start_and_play(save_directory=str(self.target))
        sequence = listener.newest().sequence
        listener.wait_for_clouds()
        response = self.call('reset', Trigger)
        self.assertTrue(response.success, response.message)
        wait_for(lambda: {cloud.width for cloud in listener.clouds.values()} == {0},
                 'empty clouds after the reset')
        self.assert_refused(self.save('room'), 'no map yet')

        # The rest of the flight, so that time goes on.
        rest = cut(self.whole_bag, self.directory / 'rest.bag', '/points', SCANS, first=SCANS)
        offline = self.evaluate(rest, PARAMETERS)
        self.play(rest, '--rate=2')
        newest = listener.wait_for_integrated(2 * SCANS)
        self.assertEqual(newest.dropped, 0)
        self.assertEqual(newest.occupied, offline['occupied'])
        self.assertGreater(newest.sequence, sequence)
        self.assert_clouds_equal_offline(listener, RESOLUTION)


if __name__ == '__main__':
    rospy.init_node('services_test')
    rostest.rosrun('fiimap', 'services_test', ServicesTest)
